"""Networks of openings between zones: IEA multi-zone cases, and four zones of Haghighat and Megri."""
