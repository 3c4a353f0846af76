"use strict";
// The trace as the program embedded it (tool/src/report/report_data.cpp), made ready to be drawn.

/** Columns of slices: times become absolute, the rest typed arrays. */
function readColumns(columns) {
  const count = columns.begin.length;
  const result = {count, begin: new Float64Array(count), end: new Float64Array(count)};
  let time = 0;
  for (let i = 0; i < count; ++i) {
    time += columns.begin[i];
    result.begin[i] = time;
    result.end[i] = time + columns.duration[i];
  }
  for (const key of Object.keys(columns)) {
    if (key === "begin" || key === "duration") continue;
    result[key] = key === "number" ? Float64Array.from(columns[key]) : Uint32Array.from(columns[key]);
  }
  return result;
}

/** One row of all these events, or of those with a row number of their own. */
function rowsOf(columns) {
  const members = [];
  for (let i = 0; i < columns.count; ++i) {
    const row = columns.row ? columns.row[i] : 0;
    while (members.length <= row) members.push([]);
    members[row].push(i);
  }
  return members.map((indices) => new Row(Float64Array.from(indices, (i) => columns.begin[i]),
                                          Float64Array.from(indices, (i) => columns.end[i]), Uint32Array.from(indices)));
}

class Spe {
  constructor(number, data, names) {
    this.number = number;
    this.names = names;
    this.jobs = readColumns(data.jobs);
    this.waits = readColumns(data.waits);
    this.commands = readColumns(data.commands);
    this.findings = data.findings.map((finding) => ({...finding, spe: number})).sort((a, b) => a.when - b.when);
    this.dropped = data.dropped;

    const empty = () => new Row(new Float64Array(0), new Float64Array(0), new Uint32Array(0));
    this.jobRow = rowsOf(this.jobs)[0] ?? empty();
    this.waitRow = rowsOf(this.waits)[0] ?? empty();
    this.jobWaits = this.waitRow.within(this.jobRow);  // outside of jobs it waits for the next: it is idle
    this.commandRows = rowsOf(this.commands);
    const bytes = (row, wanted) =>
        new Sum(row, (i) => wanted(this.direction(row.index[i])) ? this.commands.bytes[row.index[i]] : 0);
    this.gets = this.commandRows.map((row) => bytes(row, (d) => d === "get"));
    this.puts = this.commandRows.map((row) => bytes(row, (d) => d === "put"));
  }

  name(columns, i) { return this.names[columns.name[i]]; }

  /** "get" (into local store), "put" (out of it), or "other" for what moves nothing. */
  direction(command) {
    const name = this.name(this.commands, command);
    return name.startsWith("get") ? "get" : name.startsWith("put") || name.startsWith("sndsig") ? "put" : "other";
  }

  last() {
    const ends = [this.jobs, this.waits, this.commands].map((c) => c.end.reduce((a, b) => Math.max(a, b), 0));
    return this.findings.reduce((last, finding) => Math.max(last, finding.when), Math.max(...ends));
  }

  first() {
    const begins = [this.jobs, this.waits, this.commands].map((c) => c.count > 0 ? c.begin[0] : Infinity);
    return this.findings.reduce((first, finding) => Math.min(first, finding.when), Math.min(...begins));
  }
}

class Trace {
  constructor(data) {
    this.version = data.version;
    this.simulated = data.simulated;
    this.images = data.images;
    this.spes = data.spes.map((spe, number) => new Spe(number, spe, data.names));
    const first = Math.min(...this.spes.map((spe) => spe.first()));
    this.begin = Number.isFinite(first) ? first : 0;
    this.end = Math.max(this.begin + 1000, ...this.spes.map((spe) => spe.last()));
    this.kernels = this.namesIn("jobs");
    this.channels = this.namesIn("waits");
    this.findings = this.spes.flatMap((spe) => spe.findings).sort((a, b) => a.when - b.when);
    for (const spe of this.spes) {
      spe.waitsOn = this.channels.map((channel) => spe.jobWaits.filter((i) => spe.name(spe.waits, spe.jobWaits.index[i]) === channel));
    }
  }

  /** The names of the events of a kind, sorted, so that each has the same colour in every trace of a program. */
  namesIn(kind) {
    const used = new Set();
    for (const spe of this.spes) for (const name of spe[kind].name) used.add(spe.names[name]);
    return [...used].sort();
  }

  /** The channels on which jobs wait: [name, its number in `channels`]. */
  jobChannels() {
    return [...this.channels.entries()].filter(([i]) => this.spes.some((spe) => spe.waitsOn[i].length > 0)).map(([i, name]) => [name, i]);
  }

  count(kind) { return this.spes.reduce((sum, spe) => sum + spe[kind].count, 0); }
  total(number) { return this.spes.reduce((sum, spe) => sum + number(spe), 0); }
}
