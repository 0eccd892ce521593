// What the page uses of uPlot; drawing reads `_show`, `_splits`, `_values` and `_lpos` of its axes too.
declare class uPlot {
  constructor(options: any, data: any, place: HTMLElement);
  static rangeNum(low: number, high: number, pad: number, soft: boolean): [number, number];
  width: number;
  height: number;
  bbox: { left: number; top: number; width: number; height: number };
  ctx: CanvasRenderingContext2D;
  over: HTMLElement;
  cursor: { idx?: number | null; left?: number; top?: number };
  scales: { [key: string]: { min: number; max: number } };
  axes: { label: string; _show: boolean; _lpos: number; _splits?: number[]; _values?: string[] }[];
  setData(data: any, resetScales?: boolean): void;
  setScale(scale: string, limits: { min: number; max: number }): void;
  setSize(size: { width: number; height: number }): void;
  setCursor(place: { left: number; top: number }, fire?: boolean, publish?: boolean): void;
  valToPos(value: number, scale: string, onCanvas?: boolean): number;
  posToVal(place: number, scale: string): number;
  batch(change: () => void): void;
  redraw(paths?: boolean, axes?: boolean): void;
  destroy(): void;
}
export default uPlot;
