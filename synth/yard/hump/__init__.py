"""The control of a hump: what switches, retarders and signals do while a train is humped ([kozachenko-control], S0)."""
