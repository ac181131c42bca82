"""Materials: heat, phase change, moisture."""
