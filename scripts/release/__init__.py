"""All checks of a release, and the files that are released: `scripts/release_check`."""
