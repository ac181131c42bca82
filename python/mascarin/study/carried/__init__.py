"""What a study hands on: the calibrated building with its posterior, and bands made with it elsewhere."""
