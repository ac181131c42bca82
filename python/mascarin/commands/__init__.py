"""The commands, one module for each room; registered in `mascarin.cli`."""
