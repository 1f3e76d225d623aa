// How far a pair is known, as the reports say it (PairStatus of monitor/report.hpp).

export const STATUS = ["converged", "touching", "overlapping", "iteration limit", "carried", "stale", "unknown", "absent"];
const STALE = STATUS.indexOf("stale");

export const isKnown = (pair) => pair.status < STALE;
