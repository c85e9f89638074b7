"""What a control computer and more exact retarders pay: savings, pay-back, and how sure these are.

The order of the steps: figures of a hump today and with the new control (`hump_day_figures`, `hump_day_change`) and the
traffic give the work of a day (`hump_work`, which asks `hump_queue` how long trains wait); prices turn the difference
of two days into money (`savings`); that pays for the investment (`pay_back`, `present_value`, `internal_rate`), all of
it in `economic_case`. `uncertainty` carries ranges of any inputs through to any outputs.
"""
