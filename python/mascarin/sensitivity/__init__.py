"""Which parameters matter, for which output, when and with what certainty."""
