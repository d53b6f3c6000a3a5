"""The text of scenes: YAML with line numbers, overrides, and back to YAML."""
