"""What descriptions mean: objects of the map, people, pronouns, groups, places by relation."""
