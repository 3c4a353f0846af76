"use strict";
// Puts the page together and answers the reader.

(() => {
  const byId = (id) => document.getElementById(id);
  const trace = new Trace(JSON.parse(byId("trace").textContent));
  const view = new View(trace.begin, trace.end);
  const timeline = new Timeline(byId("timeline"), trace, view);
  const bandwidth = new Bandwidth(byId("bandwidth"), byId("bandwidth-numbers"), trace, timeline);
  const tooltip = byId("tooltip");

  // Pictures are drawn once a frame, however often something changes.
  let pending = 0;
  function redraw() {
    pending ||= requestAnimationFrame(() => {
      pending = 0;
      timeline.draw();
      bandwidth.draw();
    });
  }

  // Tables follow when the range has come to rest.
  let settling = 0;
  function showRange() {
    const [from, to] = [view.begin, view.end].map((time) => format.timeInSteps(time - trace.begin, roundStep(view.span / 200), view.end - trace.begin));
    byId("range").textContent = `${from} to ${to} (${format.time(view.span)})`;
    drawShares(byId("shares"), byId("shares-legend"), trace, timeline);
  }
  view.onChange(() => {
    redraw();
    clearTimeout(settling);
    settling = setTimeout(showRange, 60);
  });

  function showAll() {
    colours.forget();
    byId("subtitle").textContent = `${plural(trace.count("jobs"), "job")} on ${plural(trace.spes.length, "SPE")}, recorded by softcell ${trace.version}`;
    byId("written-by").textContent = `softcell report of a trace by softcell ${trace.version}. Times are of the ${trace.simulated ? "simulated clocks of the SPEs" : "host's steady clock"}, from the first event on.`;
    const legend = [...trace.kernels.map((name) => [timeline.kernelColour(name), name]),
                    ...trace.channels.map((name) => [timeline.channelColour(name), `waits on ${name}`]),
                    [colours.of("get"), "get"], [colours.of("put"), "put"], [colours.of("other"), "other commands"], [colours.of("bad"), "finding, failure"]];
    byId("timeline-legend").replaceChildren(...legend.map(([colour, text]) => element("li", {}, swatch(colour), text)));
    showNotes(byId("notes"), trace);
    showSummary(byId("summary"), trace);
    showFindings(byId("findings-body"), trace, showFinding);
    showKernels(byId("kernels"), trace, timeline);
    showCommands(byId("commands"), trace);
    showStores(byId("stores"), trace);
    showRange();
    redraw();
  }

  function select(what) {
    timeline.selected = what && what.row ? what : null;
    const box = byId("selection");
    if (what) {
      const {title, facts: list} = describe(what, trace);
      box.replaceChildren(element("strong", {}, title), element("dl", {class: "facts"},
        ...list.map(([word, value]) => element("div", {}, element("dt", {}, word), element("dd", {}, String(value))))));
    } else {
      box.replaceChildren();
    }
    redraw();
  }

  function showFinding(finding) {
    view.show(finding.when, finding.when);
    select({finding});
    byId("timeline").scrollIntoView({block: "nearest"});
    byId("timeline").focus({preventScroll: true});
  }

  function showTooltip(event, description) {
    tooltip.hidden = !description;
    if (!description) return;
    tooltip.replaceChildren(element("strong", {}, description.title), facts(description.facts));
    const chart = tooltip.parentElement.getBoundingClientRect();
    const x = event.clientX - chart.left, y = event.clientY - chart.top;
    const left = x + 16 + tooltip.offsetWidth > chart.width ? x - tooltip.offsetWidth - 12 : x + 16;
    tooltip.style.left = `${Math.max(0, left)}px`;
    tooltip.style.top = `${y + 18}px`;
  }

  // The pointer: hovering, dragging, the wheel.
  let drag = null;
  const place = (event, canvas) => {
    const box = canvas.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top};
  };
  for (const canvas of [timeline.canvas, bandwidth.canvas]) {
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      const {x} = place(event, canvas);
      drag = {x, begin: view.begin, moved: false};
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      const {x, y} = place(event, canvas);
      if (drag) {
        drag.moved ||= Math.abs(x - drag.x) > 3;
        if (drag.moved) {
          canvas.classList.add("dragging");
          view.pan(drag.begin - (x - drag.x) / timeline.width * view.span - view.begin);
        }
      }
      timeline.cursor = x < kGutter ? null : timeline.time(x);
      const what = canvas === timeline.canvas ? timeline.at(x, y) : null;
      const description = what ? describe(what, trace) : canvas === bandwidth.canvas && timeline.cursor !== null ? bandwidth.at(timeline.cursor) : null;
      showTooltip(event, drag?.moved ? null : description);
      redraw();
    });
    canvas.addEventListener("pointerup", (event) => {
      const {x, y} = place(event, canvas);
      if (drag && !drag.moved && canvas === timeline.canvas) select(timeline.at(x, y));
      drag = null;
      canvas.classList.remove("dragging");
    });
    canvas.addEventListener("pointercancel", () => {
      drag = null;
      canvas.classList.remove("dragging");
    });
    canvas.addEventListener("pointerleave", () => {
      timeline.cursor = null;
      tooltip.hidden = true;
      redraw();
    });
    canvas.addEventListener("wheel", (event) => {
      const {x} = place(event, canvas);
      if (x < kGutter || event.ctrlKey) return;  // over the names the page scrolls
      event.preventDefault();
      const step = (delta) => Math.max(-400, Math.min(400, event.deltaMode === 1 ? delta * 33 : delta));
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
        view.pan((step(event.deltaX || event.deltaY)) / timeline.width * view.span);
      } else {
        view.zoom(1.0022 ** step(event.deltaY), timeline.time(x));
      }
    }, {passive: false});
  }
  timeline.canvas.addEventListener("dblclick", (event) => {
    const {x, y} = place(event, timeline.canvas), what = timeline.at(x, y);
    if (what?.row) view.show(what.row.columns.begin[what.event], what.row.columns.end[what.event]);
  });

  // The keyboard.
  function stepJob(by) {
    const rows = timeline.rows.filter((row) => row.kind === "job");
    const row = timeline.selected ? rows[timeline.selected.row.spe.number] : rows.find((r) => r.row.length > 0);
    if (!row || row.row.length === 0) return;
    const {selected} = timeline;
    let i;
    if (selected && selected.row === row) {
      i = row.row.begunBefore(row.columns.begin[selected.event]) + by;
    } else {
      i = row.row.firstEndingAfter(selected ? selected.row.columns.begin[selected.event] : view.begin);
    }
    selectJob(row, Math.min(Math.max(i, 0), row.row.length - 1));
  }

  function stepSpe(by) {
    const rows = timeline.rows.filter((row) => row.kind === "job" && row.row.length > 0);
    if (rows.length === 0) return;
    const {selected} = timeline;
    const at = selected ? rows.findIndex((row) => row.spe === selected.row.spe) : -1;
    const row = rows[selected ? Math.min(Math.max(at + by, 0), rows.length - 1) : 0];
    const time = selected ? selected.row.columns.begin[selected.event] : view.begin;
    selectJob(row, Math.min(row.row.firstEndingAfter(time), row.row.length - 1));
  }

  function selectJob(row, i) {
    const event = row.row.index[i];
    view.reveal(row.columns.begin[event], row.columns.end[event]);
    select({row, event});
  }

  let lastFinding = -1;
  function nextFinding() {
    if (trace.findings.length === 0) return;
    lastFinding = (lastFinding + 1) % trace.findings.length;
    showFinding(trace.findings[lastFinding]);
  }

  const keys = {
    ArrowLeft: () => view.pan(-view.span * 0.15),
    ArrowRight: () => view.pan(view.span * 0.15),
    ArrowDown: () => stepSpe(1),
    ArrowUp: () => stepSpe(-1),
    "+": () => view.zoom(0.6),
    "=": () => view.zoom(0.6),
    "-": () => view.zoom(1 / 0.6),
    0: () => view.fit(),
    Home: () => view.fit(),
    n: () => stepJob(1),
    p: () => stepJob(-1),
    f: nextFinding,
    Escape: () => select(null),
  };
  timeline.canvas.addEventListener("keydown", (event) => {
    const action = keys[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    action();
  });

  byId("fit").addEventListener("click", () => view.fit());
  byId("zoom-in").addEventListener("click", () => view.zoom(0.5));
  byId("zoom-out").addEventListener("click", () => view.zoom(2));
  new ResizeObserver(redraw).observe(timeline.canvas.parentElement);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", showAll);

  showAll();
  // For scripts in the console, and the tests.
  window.softcellReport = {trace, view, timeline, bandwidth};
})();
