"""Laws of wear and of rolling contact fatigue."""
