"""The bounce core: floats and arrays in, floats and arrays out."""
