"""Building thermal fabric cases of ANSI/ASHRAE Standard 140 (BESTEST), as of the command bestest."""
