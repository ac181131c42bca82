"""Pages of suites of cases: Standard 140."""
