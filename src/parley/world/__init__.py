"""Where things are: object map, occupancy map, path planning, geometry."""
