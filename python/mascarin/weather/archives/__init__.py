"""Weather files of archives that other packages read, as frames with the names of pvlib."""
