"""The classes that plugins implement: rigs, contact models and wear laws."""
