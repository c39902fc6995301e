"""The display interface: pictures, cameras and maps for screens."""
