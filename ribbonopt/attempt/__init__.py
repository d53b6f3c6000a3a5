"""One solve of one scene: what is built for it, the attempts at it, and what they cost."""
