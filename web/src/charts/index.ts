export { kSides, type Side, type WallBins } from './coverage';
export { type Bone } from './depth-bone';
export { cutLines, type CutLine } from './mesh-cut';
export { DepthChart, kDepthHeight_px } from './depth-chart';
export { type ChartData } from './chart-files';
export { makeCursor, type Cursor } from './cursor';
export { whole, type Range } from './range';
export { PaintedTract } from './painted-tract';
export { PaintedWall, type WallCell } from './painted-wall';
export { curve, Plane, stairs, type Places, type PlaneAxis } from './plane';
export { PlanView } from './plan-view';
export { SliceView } from './slice-view';
export { normalOf, type SliceBall, type SliceBrush, type SliceMark, type SlicePicture } from './slice-places';
export { SignalChart } from './signal-chart';
export type { Level, Mark, Panel, Span, Trace } from './signal-types';
export {
  assemble,
  coarser,
  kNoDetail,
  kTilePoints,
  lowerBound,
  tileRange,
  tilesFor,
  type Detail,
  type Tile,
} from './tiles';
export { TractView } from './tract-view';
export { bandLevel, WallBands, type SideBands } from './wall-bands';
export { WallMap } from './wall-map';
