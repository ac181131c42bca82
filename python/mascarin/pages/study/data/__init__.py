"""The results of a study as the page reads them."""
