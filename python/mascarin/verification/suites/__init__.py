"""Public test suites: cases that others have published, with the numbers of other programs beside ours."""
