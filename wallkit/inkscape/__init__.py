"""What Inkscape's extensions of wallkit do: Check, Shoot and Export, on the document that is open there."""
