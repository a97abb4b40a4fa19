"""What a plugin implements: rigs, contact models and wear laws."""
