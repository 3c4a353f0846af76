"use strict";
// What the timeline shows, in sums: bandwidth over time, and where each SPE's time goes.

/** Bytes moved by all SPEs up to `time`: {get, put}. */
function movedUpTo(trace, time) {
  let get = 0, put = 0;
  for (const spe of trace.spes) {
    for (let i = 0; i < spe.commandRows.length; ++i) {
      const begun = spe.commandRows[i].begunBefore(time);
      get += spe.gets[i].upTo(begun, time);
      put += spe.puts[i].upTo(begun, time);
    }
  }
  return {get, put};
}

class Bandwidth {
  static height = 120;

  constructor(canvas, numbers, trace, timeline) {
    this.canvas = canvas;
    this.numbers = numbers;
    this.trace = trace;
    this.timeline = timeline;
  }

  /** Bytes a second in each column of pixels. */
  measure() {
    const {view, width} = this.timeline, columns = Math.floor(width);
    const seconds = view.span / columns / 1e9;
    const get = new Float64Array(columns), put = new Float64Array(columns);
    let last = movedUpTo(this.trace, view.begin);
    for (let x = 0; x < columns; ++x) {
      const now = movedUpTo(this.trace, view.begin + view.span * (x + 1) / columns);
      get[x] = (now.get - last.get) / seconds;
      put[x] = (now.put - last.put) / seconds;
      last = now;
    }
    return {get, put, peak: Math.max(1, get.reduce((a, b) => Math.max(a, b), 0), put.reduce((a, b) => Math.max(a, b), 0))};
  }

  /** The rates at a time, for the tooltip. */
  at(time) {
    const {view, width} = this.timeline, half = view.span / width / 2;
    const before = movedUpTo(this.trace, time - half), after = movedUpTo(this.trace, time + half);
    const rate = (key) => (after[key] - before[key]) / (2 * half) * 1e9;
    return {title: "DMA bandwidth", facts: [["get", format.rate(rate("get"))], ["put", format.rate(rate("put"))],
                                            ["at", format.exactTime(time - this.trace.begin)]]};
  }

  draw() {
    const c = beginDrawing(this.canvas, Bandwidth.height), {timeline} = this;
    const {get, put, peak} = this.measure();
    const middle = Bandwidth.height / 2, reach = middle - 10;
    c.fillStyle = colours.of("grid");
    for (const time of ticks(timeline.view, timeline.width).times) c.fillRect(Math.round(timeline.x(time)), 0, 1, Bandwidth.height);
    for (const part of [-1, 1]) c.fillRect(kGutter, middle + part * reach, timeline.width, 1);
    this.fill(c, get, "get", middle, -reach / peak);
    this.fill(c, put, "put", middle, reach / peak);
    c.fillStyle = colours.of("quiet");
    c.fillRect(kGutter, middle, timeline.width, 1);
    c.textAlign = "right";
    c.font = c.font.replace("12px", "10px");
    for (const [text, y] of [[format.rate(peak), middle - reach], ["get", middle - reach / 2], ["0", middle], ["put", middle + reach / 2]]) {
      c.fillText(text, kGutter - 7, y);
    }
    drawCursor(c, timeline.cursor, timeline);
    this.describe();
  }

  fill(c, rates, colour, base, scale) {
    c.beginPath();
    c.moveTo(kGutter, base);
    rates.forEach((rate, x) => {
      c.lineTo(kGutter + x, base + rate * scale);
      c.lineTo(kGutter + x + 1, base + rate * scale);
    });
    c.lineTo(kGutter + rates.length, base);
    c.fillStyle = colours.of(colour);
    c.fill();
  }

  describe() {
    const {view} = this.timeline, seconds = view.span / 1e9;
    const from = movedUpTo(this.trace, view.begin), to = movedUpTo(this.trace, view.end);
    const part = (key) => `${key} ${format.bytes(to[key] - from[key])} at ${format.rate((to[key] - from[key]) / seconds)}`;
    this.numbers.textContent = `Moved in the visible range: ${part("get")}, ${part("put")} on average. ` +
        "A command's bytes are spread over the time from its issue to its completion.";
  }
}

/** The parts of one SPE's time in a range: [name, colour, share], in the order in which they are stacked. */
function timeShares(spe, trace, timeline) {
  const {begin, end} = timeline.view, span = end - begin;
  const waits = trace.jobChannels().map(([name, i]) => [name, timeline.channelColour(name), spe.waitsOn[i].busy.between(begin, end) / span]);
  const waiting = waits.reduce((sum, [, , share]) => sum + share, 0);
  const running = spe.jobRow.busy.between(begin, end) / span;
  return [["working", colours.of("work"), Math.max(0, running - waiting)], ...waits, ["no job", colours.of("idle"), Math.max(0, 1 - running)]];
}

function drawShares(table, legend, trace, timeline) {
  const rows = trace.spes.map((spe) => ({spe, shares: timeShares(spe, trace, timeline)}));
  const parts = rows[0].shares;
  legend.replaceChildren(...parts.map(([name, colour]) => element("li", {}, swatch(colour), name === "working" || name === "no job" ? name : `waits on ${name}`)));
  const head = element("tr", {}, ...["SPE", "", ...parts.map(([name]) => name)].map((text) => element("th", {scope: "col"}, text)));
  const body = rows.map(({spe, shares}) => {
    const bar = element("div", {class: "stack-bar", "aria-hidden": "true"});
    for (const [name, colour, share] of shares) {
      bar.append(element("span", {style: `width:${100 * share}%;background:${colour}`, title: `${name}: ${format.percent(share)}`}));
    }
    return element("tr", {}, element("th", {scope: "row"}, `SPE ${spe.number}`), element("td", {class: "bar"}, bar),
                   ...shares.map(([, , share]) => element("td", {}, format.percent(share))));
  });
  table.replaceChildren(element("thead", {}, head), element("tbody", {}, ...body));
}
