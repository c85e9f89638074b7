"""Tables as code for controllers: C99 and Structured Text of one declaration.

Read in this order: `code` (what is exported: records, rules, tables, golden questions), `line_code` (tables with
switching lines as such a declaration; `aim_code`, `correction_code`), `c_code` and `c_self_test`, `st_code` and
`st_self_test` (the two languages).
"""
