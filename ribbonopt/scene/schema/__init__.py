"""The schema of scenes: validation, messages, and the JSON schema of editors."""
