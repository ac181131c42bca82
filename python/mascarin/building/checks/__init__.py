"""Whether a description fits together and is plausible."""
