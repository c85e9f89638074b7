"""Long work in parts: processes on this machine, or a cluster, that answer one order after another."""
