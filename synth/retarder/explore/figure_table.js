"use strict";
// The figures of the cuts on the page, and of the simulated passes of the case, under the table and under the rule.
const FigureTable = (() => {
  const DECIMALS = 4;

  // `format`: of numbers; [value, low, high] with its interval.
  const between = ([value, low, high], format) => `${format(value)} [${format(low)}, ${format(high)}]`;

  // Rows of text: a name, then a cell for each of `here` (figures of `Figures.of`) and of `simulated`.
  function rows({ here, simulated, nearer, overspeedMS }, { unit, number, withUnit }) {
    const speed = (value) => Number.isFinite(value) ? number(value, DECIMALS).replace("-", "−") : "∞";
    const percent = (value) => `${(100 * value).toFixed(value < 0.1 ? 2 : 1)} %`, plain = (value) => value.toFixed(1);
    const row = (name, key, format) => [name, ...[...here, ...simulated].map((found) => between(found[key], format))];
    const rms = [...here.map(({ rms: value }) => `${speed(value)} of these cuts`), ...simulated.map((found) => between(found.rms, speed))];
    const found = [
      [`rms of the exit error, ${unit}`, ...rms],
      row(`95 of 100 leave within ±, ${unit}`, "within", speed),
      row(`mean exit error, ${unit}`, "bias", speed),
      row(`more than ${withUnit(overspeedMS, 1)} too fast`, "overspeed", percent),
      row("stands in the position", "stalled", percent),
      row("commands of a cut", "commands", plain),
      row("time from where the regulator acts, s", "time", plain),
    ];
    if (nearer) {
      const [value, low, high] = nearer;
      const cells = [nearer, [1 - value, 1 - high, 1 - low]].map((share) => between(share, percent));
      found.push(["leaves nearer to the target than beside", ...cells, ...simulated.map(() => "")]);
    }
    return found;
  }

  // Puts rows under titles into a table; on a telephone each cell bears its title.
  function show(head, body, titles, lines) {
    const made = (tag, textContent, label) => {
      const cell = Object.assign(document.createElement(tag), { textContent });
      if (label) cell.dataset.label = label;
      return cell;
    };
    head.replaceChildren(made("th", "figure"), ...titles.map((title) => made("th", title)));
    body.replaceChildren(...lines.map(([name, ...cells]) => {
      const line = document.createElement("tr");
      line.append(made("th", name), ...cells.map((text, place) => made("td", text, titles[place])));
      return line;
    }));
  }

  return { rows, show };
})();
