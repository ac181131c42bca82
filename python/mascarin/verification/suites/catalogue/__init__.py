"""A folder for each suite: suite.yaml says what it is, cases.py describes and runs its cases."""
