"use strict";
// The words of the drawings, and what stands beside the table.
const Legends = (() => {
  const at = (id) => document.getElementById(id);

  // [colour, kind of the mark, text] each.
  function key(id, entries) {
    at(id).replaceChildren(...entries.map(([colour, kind, text]) => {
      const entry = document.createElement("span"), mark = document.createElement("i");
      mark.className = kind;
      mark.style.color = `var(--${colour})`;
      entry.append(mark, text);
      return entry;
    }));
  }

  const BY_RADAR = [["upper", "", "upper line of the stage in force: raise above it"], ["lower", "dash", "lower line: lower below it"],
    ["soft", "thin", "thin: the same lines for the whole path, at the moment that is explained"]];
  const BY_PULSES = [["upper", "", "switching speed to the next higher stage"], ["lower", "dash", "to the next lower one"],
    ["soft", "triangle", "sensor"]];

  function showKeys({ of: { plant }, told }, { overspeedMS, withUnit }) {
    const radar = Controls.isRadar(plant), rule = told.rule ? [["rule", "dashdot", `under the ${told.rule.name}`]] : [];
    key("speed-key", [["ink", "", "true speed under this table"], ...rule, ["radar", "ring", radar ? "radar" : "reading of a sensor"],
      ...(told.held.breaks > 0 ? [["estimate", "disc", "estimate of the table"]] : []), ...(radar ? BY_RADAR : BY_PULSES),
      ["ink", "dots", "target"], ["zone", "fill", "retarders"]]);
    key("pressure-key", [["ink", "", "pressure under this table"], ...rule,
      ["upper", "dash", "pressure of the stage that the table commands"], ["soft", "dots", "the pads touch"]]);
    key("cloud-key", [["radar", "fill", "cuts under this table"], ...(told.rule ? [["rule", "fill", rule[0][2]]] : []),
      ["ink", "", `what the ${told.simulated.n} simulated passes of the case let expect`], ["ink", "dots", "target, or no error"],
      ["upper", "dash", `${withUnit(overspeedMS, 1)} too fast`]]);
  }

  // A parameter by its name, which ends with its unit.
  function parameter([name, value], withUnit) {
    const words = name.replace(/_(m_s|s)$/, "").replaceAll("_", " ");
    return `${words} ${name.endsWith("_m_s") ? withUnit(value, 3) : name.endsWith("_s") ? `${value} s` : value}`;
  }

  function showRule({ told: { rule, predicted_m_s: predicted } }, { withUnit }) {
    for (const id of ["rule-panel", "rule-many"]) at(id).hidden = !rule;
    const passes = `The simulated passes are those of a tune. The table itself predicts an rms of ${withUnit(predicted, 4)}.`;
    if (!rule) {
      at("about").textContent = `${passes} No classical rule is tuned for point sensors, so none stands beside the table.`;
      return;
    }
    const parameters = Object.entries(rule.parameters).map((each) => parameter(each, withUnit)).join(", ");
    at("about").textContent = `${passes} Relay and energy rule were tuned for this case on other passes, and the ${rule.name} is the ` +
      `better one: ${parameters}. It compares the measured speed with its lines, without an estimator.`;
    at("rule-who").textContent = `${rule.name}, the best classical rule`;
    at("rule-title").textContent = `Under the ${rule.name}`;
  }

  // `choice`: the class `of` a table, and what the page was `told` of it.
  function show(choice, manner) {
    showKeys(choice, manner);
    showRule(choice, manner);
  }

  return { show };
})();
