"""The control of a hump: what its elements do while a train is humped ([kozachenko-control], [hump-computer-1970s])."""
