"""The series of a run: times, blocks of rows, files, and what they were made from."""
