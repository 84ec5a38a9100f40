"""SVG reader."""
