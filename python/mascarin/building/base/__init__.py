"""What every part of a description is made of: numbers, names, paths, errors."""
