"""The objects of a file, and what all steps of a conversion share."""
