"""The page that plays a humped train on the plan of its hump."""
