"""The rigs, contact models, stages and laws that come with wearlaw, each a plugin like any other, and what they share."""
