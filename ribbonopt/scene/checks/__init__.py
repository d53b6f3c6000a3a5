"""What can be wrong with a scene and needs no mechanics to see."""
