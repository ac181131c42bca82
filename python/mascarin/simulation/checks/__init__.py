"""What a run is judged by: balances, limits of steps, laws that hold."""
