"""From a building, a climate and options to arrays that the engine runs."""
