"""Cases of several zones of IEA Task 34/43, MZ320 to MZ360."""
