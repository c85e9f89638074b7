"""Which assumed number of a plant moves the exits of a given table most: shares of variance by parameter."""
