"""What all methods share: factors, runs, results, jackknife."""
