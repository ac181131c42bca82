"""The frame, style and policy of all pages."""
