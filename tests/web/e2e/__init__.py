"""What the stories of the page in a browser need beside `parley demo`; started by `frontend/e2e`."""
