"""`retarder-synth init`: a configuration to start from, and what the library holds."""

from __future__ import annotations

import json


def init_command(retarder: str | None, show_list: bool, as_json: bool) -> int:
    """Print the commented configuration of `retarder` (the default one for None), or the list of retarders."""
    from plant_models.library import load_retarder, retarder_names
    from synth.configuration.config_template import default_config_toml
    from synth.configuration.settings import DEFAULT_RETARDER

    if show_list:
        titles = {name: load_retarder(name).title for name in retarder_names()}
        width = max(map(len, titles))
        text = "\n".join(f"{name:<{width}}  {title}" for name, title in titles.items())
        print(json.dumps({"retarders": titles}, indent=1, ensure_ascii=False) if as_json else text)
        return 0
    text = default_config_toml(retarder or DEFAULT_RETARDER)
    print(json.dumps({"configuration": text}, ensure_ascii=False) if as_json else text, end="\n" if as_json else "")
    return 0
