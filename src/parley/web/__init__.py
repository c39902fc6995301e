"""The operator's page: a client of the topics that serves REST, a live stream and the built front end."""
