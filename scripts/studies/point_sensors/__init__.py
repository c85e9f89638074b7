"""What point sensors are worth beside a radar, by their number, their places and the axles that are decided on."""
