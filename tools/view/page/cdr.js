// CDR (XCDR1, little-endian) read by the IDL that the server sends with each channel: constants are
// passed over, structs hold numbers, booleans, strings, structs and sequences of these.

const NUMBERS = {
  octet: [1, (view, at) => view.getUint8(at)],
  boolean: [1, (view, at) => view.getUint8(at) !== 0],
  "unsigned long": [4, (view, at) => view.getUint32(at, true)],
  long: [4, (view, at) => view.getInt32(at, true)],
  float: [4, (view, at) => view.getFloat32(at, true)],
  double: [8, (view, at) => view.getFloat64(at, true)],
  // As doubles: exact below 2^53; times in ns to 256 ns.
  "unsigned long long": [8, (view, at) => view.getUint32(at + 4, true) * 2 ** 32 + view.getUint32(at, true)],
  "long long": [8, (view, at) => view.getInt32(at + 4, true) * 2 ** 32 + view.getUint32(at, true)],
};

// Reads one message: numbers are aligned to their size, counted from behind the 4-byte header.
export class CdrReader {
  constructor(bytes) {
    this.view = bytes;
    this.at = 4;
  }
  number([size, read]) {
    this.at += (size - ((this.at - 4) % size)) % size;
    const value = read(this.view, this.at);
    this.at += size;
    return value;
  }
  string() {
    const length = this.number(NUMBERS["unsigned long"]);
    const bytes = new Uint8Array(this.view.buffer, this.view.byteOffset + this.at, Math.max(0, length - 1));
    this.at += length;
    return TEXT.decode(bytes);
  }
  sequence(item) {
    const length = this.number(NUMBERS["unsigned long"]);
    return Array.from({ length }, () => item(this));
  }
}
const TEXT = new TextDecoder();

// A function from reader to value, for a type as IDL writes it.
function readerOf(type, structs) {
  const sequence = /^sequence\s*<\s*([^,>]+(?:<[^>]*>)?)\s*(?:,[^>]*)?>$/.exec(type);
  if (sequence) {
    const item = readerOf(sequence[1].trim(), structs);
    return (reader) => reader.sequence(item);
  }
  if (/^string\b/.test(type)) return (reader) => reader.string();
  if (NUMBERS[type]) return (reader) => reader.number(NUMBERS[type]);
  if (structs.has(type)) return structs.get(type);
  throw new Error(`the IDL uses ${type}, which this page does not know`);
}

function structReader(body, structs) {
  const fields = body.split(";").map((line) => line.replace(/@\w+(\([^)]*\))?/g, "").trim()).filter(Boolean)
    .map((line) => /^(.*[\s>])(\w+)$/s.exec(line))
    .map(([, type, name]) => [name, readerOf(type.trim().replace(/\s+/g, " "), structs)]);
  return (reader) => {
    const value = {};
    for (const [name, read] of fields) value[name] = read(reader);
    return value;
  };
}

// decoder("... IDL ...", "clearance::msg::Distances")(dataView) is the message.
export function decoder(idl, type) {
  const structs = new Map();
  for (const [, name, body] of idl.matchAll(/struct\s+(\w+)\s*\{([^}]*)\}/g)) {
    structs.set(name, structReader(body, structs));
  }
  const read = structs.get(type.split("::").pop());
  return (bytes) => read(new CdrReader(bytes));
}

// tf2_msgs/msg/TFMessage: [child frame, [x, y, z, qx, qy, qz, qw]] of each transform.
export function transforms(bytes) {
  const { long, double } = NUMBERS;
  return new CdrReader(bytes).sequence((reader) => {
    reader.number(long);
    reader.number(long);
    reader.string();
    return [reader.string(), Array.from({ length: 7 }, () => reader.number(double))];
  });
}
