"""One scene, branch or study under several laws, side by side."""
