"""From a drawing to walls, pass by pass."""
