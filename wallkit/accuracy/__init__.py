"""Speed against error: the report, the known answers, the horizon of a run."""
