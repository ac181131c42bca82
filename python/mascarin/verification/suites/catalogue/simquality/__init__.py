"""SimQuality, test functions 3 to 9."""
