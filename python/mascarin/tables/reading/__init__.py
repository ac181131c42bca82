"""Files of tables as regular series: encoding, layout, numbers, times."""
