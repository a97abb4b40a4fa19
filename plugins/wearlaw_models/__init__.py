"""The rigs, contact models, stages and laws that come with wearlaw, each a plugin, and what several of them use."""
