"""Humps as railML 3: the elements that railML has by its own names, retarders and the like in a namespace of ours."""
