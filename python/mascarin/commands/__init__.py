"""The commands of the command line, registered in `mascarin.cli`."""
