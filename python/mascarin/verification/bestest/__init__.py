"""The building thermal fabric cases of ANSI/ASHRAE Standard 140 (BESTEST), and results of six programs."""
