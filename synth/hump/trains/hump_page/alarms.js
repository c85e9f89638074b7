"use strict";
// The alarms of all runs by time: marks below the slider, lines in the list of each run, jumps from one to another.

const BEFORE_ALARM_S = 3, TOLD_ALARM_S = 6;
const GENTLE = "not separated, or met gently", PALE = "#c3cad2";
const KINDS = {
  misrouted: { told: "misrouted", colour: "#d55e00" },
  contact: { told: "in contact", colour: "#7b3294" },
  foul: { told: "foul", colour: "#0072b2" },
  overspeed: { told: "coupled too fast", colour: "#e69f00" },
  stopped: { told: "stopped", colour: "#222222" },
  unseparated: { told: GENTLE, colour: PALE },
  on_track: { told: GENTLE, colour: PALE },
};

const child = (parent, kind, properties = {}) => {
  const made = Object.assign(document.createElement(kind), properties);
  parent.append(made);
  return made;
};

class Alarms {
  // panels: of the runs; clock: begin, end, now, stop(), and show(time); speed(m_s): a speed in words with its unit.
  constructor(panels, strip, clock, speed) {
    Object.assign(this, { clock, speed, jumped: null });
    const ofRun = ({ run, ways, lists }, lane) => ways.alarms.map((alarm) => ({ ...alarm, run, lists, lane }));
    this.all = panels.flatMap(ofRun).sort((one, other) => one.t - other.t);
    this.severe = this.all.filter((alarm) => alarm.severe);
    this.marks = this.all.map((alarm) => this.button(strip, alarm));
    this.lines = this.all.map((alarm) => this.button(child(alarm.lists.querySelector(".alarms"), "li"), alarm));
    strip.style.setProperty("--lanes", panels.length);
    this.marks.forEach((mark, place) => {
      mark.style.setProperty("--share", (this.all[place].t - clock.begin) / (clock.end - clock.begin));
      mark.style.setProperty("--lane", this.all[place].lane);
      mark.tabIndex = place === 0 ? 0 : -1;
    });
    strip.addEventListener("keydown", (event) => this.moveFocus(event));
    for (const { ways, lists } of panels) {
      if (ways.alarms.length === 0) child(lists.querySelector(".alarms"), "li", { textContent: "none" });
    }
  }

  button(parent, alarm) {
    const made = child(parent, "button", { type: "button" });
    made.classList.toggle("pale", !alarm.severe);
    made.style.setProperty("--kind", KINDS[alarm.kind].colour);
    made.addEventListener("click", () => this.jump(alarm));
    return made;
  }

  jump(alarm) {
    const at = Math.max(alarm.t - BEFORE_ALARM_S, this.clock.begin);
    this.clock.stop();
    this.jumped = { alarm, at };
    this.clock.show(at);
  }

  // To the next severe alarm (by 1), or the one before (by -1); of alarms at one time each has its turn.
  step(by) {
    const { now } = this.clock, begins = ({ t }) => t - BEFORE_ALARM_S;
    let place;
    if (this.jumped && this.jumped.at === now) place = this.severe.indexOf(this.jumped.alarm) + by;
    else if (by > 0) place = this.severe.findIndex((alarm) => begins(alarm) > now);
    else place = this.severe.filter((alarm) => begins(alarm) < now).length - 1;
    if (this.severe[place]) this.jump(this.severe[place]);
  }

  // The arrow keys go from mark to mark, pale ones too.
  moveFocus(event) {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key], from = this.marks.indexOf(event.target);
    const mark = this.marks[from + by];
    if (!mark) return;
    event.preventDefault();
    event.stopPropagation();
    this.marks[from].tabIndex = -1;
    mark.tabIndex = 0;
    mark.focus();
    this.jump(this.all[from + by]);
  }

  // What is told of a time: the alarm that was jumped to, until it is over, else the last severe one.
  show(now, place) {
    const { jumped, severe } = this;
    if (jumped && (now < jumped.at || now > jumped.alarm.t + TOLD_ALARM_S)) this.jumped = null;
    const recent = severe.filter(({ t }) => t <= now && now < t + TOLD_ALARM_S).pop();
    const told = this.jumped ? this.jumped.alarm : recent;
    const number = severe.indexOf(told) + 1;
    place.textContent = told ? (number ? `Alarm ${number} of ${severe.length}. ` : "") + this.named(told) : "";
    place.style.borderColor = told ? KINDS[told.kind].colour : "transparent";
    this.all.forEach((alarm, index) => this.lines[index].classList.toggle("past", alarm.t <= now));
  }

  sentence({ t, words, m_s }) { return `${t.toFixed(1)} s: ${words}${m_s === null ? "" : `, ${this.speed(m_s)}`}`; }

  named(alarm) { return (alarm.run.name ? `${alarm.run.name}, ` : "") + this.sentence(alarm); }

  // Anew after a change of the unit.
  words() {
    this.all.forEach((alarm, place) => {
      this.lines[place].textContent = this.sentence(alarm);
      this.marks[place].title = this.named(alarm);
      this.marks[place].setAttribute("aria-label", this.named(alarm));
    });
  }
}
