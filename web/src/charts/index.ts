export { kSides, type Side, type WallBins } from './coverage';
export { makeCursor, type Cursor } from './cursor';
export { whole, type Range } from './range';
export { SignalChart } from './signal-chart';
export type { Mark, Panel, Trace } from './signal-types';
export { assemble, coarser, kNoDetail, kTilePoints, lowerBound, tileRange, tilesFor, type Detail, type Tile } from './tiles';
export { TractView } from './tract-view';
export { WallMap } from './wall-map';
