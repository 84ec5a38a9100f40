"""The same formulas for many balls at once: lockstep and waves."""
