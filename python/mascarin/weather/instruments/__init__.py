"""What measured weather says of its instruments, and how a run depends on their errors."""
