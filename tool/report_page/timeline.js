"use strict";
// The timeline: for each SPE a row of jobs, one of waits, and as many of DMA commands as were ever in flight together.

const kGutter = 76;  // pixels for the names of rows, in every chart over time
const kRightMargin = 10;

/** The page's colours, as its style sheet has them in the reader's scheme. */
const colours = {
  of(name) {
    this.known ??= getComputedStyle(document.documentElement);
    return this.known.getPropertyValue(`--${name}`).trim();
  },
  forget() { this.known = null; },
  kernel(index) { return this.of(`kernel-${index % 8}`); },
  wait(index) { return this.of(`wait-${index % 6}`); },
};

/** Sets a canvas up for its size on the screen. @return its context, in CSS pixels. */
function beginDrawing(canvas, height) {
  const scale = window.devicePixelRatio || 1, width = canvas.parentElement.clientWidth;
  canvas.style.height = `${height}px`;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = `12px ${getComputedStyle(document.body).fontFamily}`;
  context.textBaseline = "middle";
  return context;
}

/** The smallest of 1, 2, 5, 10, ... that is not below `least`. */
function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((n) => n * power).find((n) => n >= least);
}

/** Round times since the trace began for the axis, so far apart that their labels fit: {step, times}. */
function ticks(view, width) {
  const step = roundStep(view.span * 110 / width), from = view.whole.begin, times = [];
  for (let i = Math.ceil((view.begin - from) / step); i * step <= view.end - from; ++i) times.push(i * step + from);
  return {step, times};
}

/** Where rows lie, from top to bottom. */
function layOutRows(trace) {
  const rows = [];
  let y = 26;
  for (const spe of trace.spes) {
    const lane = spe.commandRows.length > 6 ? 5 : 8;
    const top = y;
    rows.push({spe, kind: "job", columns: spe.jobs, row: spe.jobRow, y, height: 20});
    y += 22;
    rows.push({spe, kind: "wait", columns: spe.waits, row: spe.waitRow, y, height: 8});
    y += 10;
    for (const row of spe.commandRows) {
      rows.push({spe, kind: "command", columns: spe.commands, row, y, height: lane - 1});
      y += lane;
    }
    rows[rows.length - 1 - spe.commandRows.length - 1].block = {top, bottom: y};
    y += 9;
  }
  return {rows, height: y};
}

class Timeline {
  constructor(canvas, trace, view) {
    this.canvas = canvas;
    this.trace = trace;
    this.view = view;
    this.selected = null;  // {row, event}
    this.cursor = null;    // time under the pointer
    Object.assign(this, layOutRows(trace));
    this.measure();
  }

  /** Takes the width of the charts from the page; once a picture, because asking the page is slow. */
  measure() { this.width = Math.max(50, this.canvas.parentElement.clientWidth - kGutter - kRightMargin); }

  x(time) { return kGutter + (time - this.view.begin) / this.view.span * this.width; }
  time(x) { return this.view.begin + (x - kGutter) / this.width * this.view.span; }

  draw() {
    const c = beginDrawing(this.canvas, this.height);
    this.measure();
    this.drawAxis(c);
    for (const row of this.rows) {
      if (row.block) this.drawName(c, row);
      c.save();
      c.beginPath();
      c.rect(kGutter, 0, this.width, this.height);
      c.clip();
      this.drawRow(c, row);
      c.restore();
    }
    this.drawFindings(c);
    this.drawSelection(c);
    drawCursor(c, this.cursor, this);
  }

  drawAxis(c) {
    c.textAlign = "center";
    const {step, times} = ticks(this.view, this.width);
    for (const time of times) {
      const x = Math.round(this.x(time)) + 0.5;
      c.fillStyle = colours.of("grid");
      c.fillRect(x - 0.5, 18, 1, this.height - 18);
      c.fillStyle = colours.of("quiet");
      const label = format.timeInSteps(time - this.trace.begin, step, this.view.end - this.trace.begin);
      if (x + c.measureText(label).width / 2 < kGutter + this.width + kRightMargin) c.fillText(label, x, 9);
    }
  }

  drawName(c, row) {
    const {top, bottom} = row.block;
    c.textAlign = "left";
    c.fillStyle = colours.of("text");
    c.font = c.font.replace("12px", "600 12px");
    c.fillText(`SPE ${row.spe.number}`, 0, top + 10);
    c.font = c.font.replace("600 12px", "12px").replace(/^600 /, "");
    c.fillStyle = colours.of("quiet");
    c.textAlign = "right";
    c.font = c.font.replace("12px", "10px");
    c.fillText("jobs", kGutter - 7, top + 10);
    c.fillText("waits", kGutter - 7, top + 26);
    if (row.spe.commandRows.length > 0) c.fillText("DMA", kGutter - 7, top + 36);
    c.font = c.font.replace("10px", "12px");
    c.fillStyle = colours.of("line");
    c.fillRect(0, bottom + 4, kGutter + this.width, 1);
  }

  colour(row, event) {
    const {spe} = row;
    if (row.kind === "job") return this.kernelColour(spe.name(spe.jobs, event));
    if (row.kind === "wait") return this.channelColour(spe.name(spe.waits, event));
    return colours.of(spe.direction(event));
  }

  kernelColour(name) { return colours.kernel(this.trace.kernels.indexOf(name)); }
  channelColour(name) { return colours.wait(this.trace.channels.indexOf(name)); }

  /** Events that are wide enough one by one; of the others a column of pixels, as strong as it is filled. */
  drawRow(c, row) {
    const {view} = this, events = row.row, scale = this.width / view.span;
    const colourOf = new Map();
    const colour = (i) => {
      const name = row.columns.name[events.index[i]];
      if (!colourOf.has(name)) colourOf.set(name, this.colour(row, events.index[i]));
      return colourOf.get(name);
    };
    for (let i = events.firstEndingAfter(view.begin); i < events.length && events.begin[i] < view.end;) {
      if ((events.end[i] - events.begin[i]) * scale >= 1.5) {
        this.drawEvent(c, row, i, colour(i));
        ++i;
        continue;
      }
      const x = Math.floor(this.x(events.begin[i]));
      const from = this.time(x), to = this.time(x + 1);
      const filled = events.busy.between(from, to) / (to - from);
      c.globalAlpha = Math.min(1, 0.35 + 0.65 * filled);
      c.fillStyle = colour(i);
      c.fillRect(x, row.y, 1, row.height);
      c.globalAlpha = 1;
      // The last event that begins in this column may reach far out of it.
      const next = Math.max(events.begunBefore(to), i + 1);
      const last = next - 1;
      i = last > i && (events.end[last] - events.begin[last]) * scale >= 1.5 ? last : next;
    }
  }

  drawEvent(c, row, i, colour) {
    const event = row.row.index[i];
    const left = Math.max(this.x(row.row.begin[i]), kGutter - 2);
    const right = Math.min(this.x(row.row.end[i]), kGutter + this.width + 2);
    const width = Math.max(right - left - (right - left > 4 ? 0.7 : 0), 1);
    c.fillStyle = colour;
    if (width > 5 && row.height > 5) {
      c.beginPath();
      c.roundRect(left, row.y, width, row.height, 2);
      c.fill();
    } else {
      c.fillRect(left, row.y, width, row.height);
    }
    const failed = row.kind === "job" ? row.columns.failed[event] : row.kind === "command" && !row.columns.completed[event];
    if (failed && width > 2) {
      c.strokeStyle = colours.of("bad");
      c.lineWidth = 2;
      c.strokeRect(left + 1, row.y + 1, width - 2, row.height - 2);
    }
    if (row.kind !== "job" || width < 28) return;
    const name = row.spe.name(row.columns, event);
    c.fillStyle = colours.of("on-colour");
    c.textAlign = "left";
    if (c.measureText(name).width < width - 8) c.fillText(name, left + 5, row.y + row.height / 2 + 0.5);
  }

  /** Flags above the jobs; those closer together than a flag is wide are one. */
  drawFindings(c) {
    c.fillStyle = colours.of("bad");
    for (const row of this.rows.filter((r) => r.kind === "job")) {
      let last = -Infinity;
      for (const finding of row.spe.findings) {
        const x = this.x(finding.when);
        if (x < kGutter || x > kGutter + this.width || x - last < 3) continue;
        last = x;
        c.beginPath();
        c.moveTo(x - 5, row.y - 6);
        c.lineTo(x + 5, row.y - 6);
        c.lineTo(x, row.y + 3);
        c.fill();
        c.fillRect(x - 0.5, row.y, 1, row.height);
      }
    }
  }

  drawSelection(c) {
    if (!this.selected) return;
    const {row, event} = this.selected;
    const left = Math.max(this.x(row.columns.begin[event]), kGutter), right = Math.min(this.x(row.columns.end[event]), kGutter + this.width);
    if (right < kGutter || left > kGutter + this.width) return;
    c.strokeStyle = colours.of("text");
    c.lineWidth = 2;
    c.strokeRect(left - 1.5, row.y - 1.5, Math.max(right - left, 1) + 3, row.height + 3);
  }

  /** What lies at a point of the canvas: {row, event}, {finding}, or null. */
  at(x, y) {
    if (x < kGutter || x > kGutter + this.width) return null;
    const time = this.time(x), slack = 4 * this.view.span / this.width;
    for (const row of this.rows) {
      if (row.kind === "job" && y >= row.y - 7 && y < row.y + 3) {
        const finding = row.spe.findings.find((f) => Math.abs(f.when - time) <= slack * 1.5);
        if (finding) return {finding};
      }
      if (y < row.y - 1 || y > row.y + row.height) continue;
      const i = row.row.near(time, slack);
      return i < 0 ? null : {row, event: row.row.index[i]};
    }
    return null;
  }
}

/** The time under the pointer, in every chart. */
function drawCursor(c, time, timeline) {
  if (time === null || time < timeline.view.begin || time > timeline.view.end) return;
  c.fillStyle = colours.of("quiet");
  c.globalAlpha = 0.6;
  c.fillRect(timeline.x(time), 0, 1, 10000);
  c.globalAlpha = 1;
}

/** What is known of an event: a title and pairs of a word and a value. */
function describe({row, event, finding}, trace) {
  if (finding) {
    return {title: finding.rule, facts: [["SPE", finding.spe], ["kernel", finding.kernel], ["place", finding.place],
                                         ["times on this SPE", format.count(finding.count)],
                                         ["at", format.exactTime(finding.when - trace.begin)], ["", finding.message]]};
  }
  const {columns, spe, kind} = row, name = spe.name(columns, event);
  const duration = columns.end[event] - columns.begin[event];
  const facts = [["SPE", spe.number], ["from", format.exactTime(columns.begin[event] - trace.begin)],
                 ["duration", format.exactTime(duration)]];
  if (kind === "job") {
    facts.push(["of it waiting", format.time(spe.jobWaits.busy.between(columns.begin[event], columns.end[event]))]);
    if (columns.failed[event]) facts.push(["result", "failed"]);
    return {title: `${name}, job ${columns.number[event]}`, facts};
  }
  if (kind === "wait") return {title: `waits on ${name}`, facts};
  const high = columns.eaHigh[event].toString(16).toUpperCase(), low = columns.eaLow[event].toString(16).toUpperCase();
  facts.push(["tag", columns.tag[event]], ["LSA", format.address(columns.lsa[event])],
             ["EA", high === "0" ? `0x${low}` : `0x${high}${low.padStart(8, "0")}`], ["moves", format.bytes(columns.bytes[event])]);
  if (columns.size[event] !== columns.bytes[event]) facts.push(["size", format.bytes(columns.size[event])]);
  if (columns.completed[event] && columns.bytes[event] > 0 && duration > 0) {
    facts.push(["rate", format.rate(columns.bytes[event] / duration * 1e9)]);
  }
  if (!columns.completed[event]) facts.push(["result", "never completed"]);
  return {title: name, facts};
}
