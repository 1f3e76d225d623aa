// The parts of Foxglove's omgidl packages that the page uses; the build makes one module of them.
import { CdrReader } from "@foxglove/cdr";

export { parseIDL } from "@foxglove/omgidl-parser";
export { MessageReader } from "@foxglove/omgidl-serialization";

// The page calculates with doubles, not with BigInt: they are exact below 2^53, and hold times in ns to 256 ns.
for (const type of ["int64", "uint64"]) {
  const read = CdrReader.prototype[type];
  CdrReader.prototype[type] = function () {
    return Number(read.call(this));
  };
}
