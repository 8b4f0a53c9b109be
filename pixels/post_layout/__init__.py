"""The analog circuits as masks: drawn, checked, extracted, simulated again."""
