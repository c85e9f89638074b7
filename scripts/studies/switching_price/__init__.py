"""Study: what fewer switchings cost in accuracy, at rest and at any time."""
