"""What is simulated: the scene, files that describe one, and where balls start."""
