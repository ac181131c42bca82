"""Pages of HTML, each one file: a study, a run, suites, designs, a building to look at or to change."""
