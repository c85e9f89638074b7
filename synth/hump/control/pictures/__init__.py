"""Pictures of a hump: the track plan and the profile with speed heads."""
