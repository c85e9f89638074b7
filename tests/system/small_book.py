"""What the tables of the small book and the files of its controller code are called."""

from __future__ import annotations

ID = "gondola-4-22t-to-1.5-m-s"
HEAVIER = "gondola-4-30t-to-1.5-m-s"
C_FILES = {
    "retarder_table.h", "retarder_table.c", "retarder_self_test.h", "retarder_self_test.c", "golden_vectors.csv",
    "golden_tracks.csv",
}  # fmt: skip
