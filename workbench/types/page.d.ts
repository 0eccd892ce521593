// Shapes that several scripts of the page share. What travels to and from the server is in namespace Server, from its schema.

type Child = Node | string | number | boolean | null | undefined | readonly Child[];
type Listeners = { [Name in keyof GlobalEventHandlersEventMap as `on${Name}`]?: (event: GlobalEventHandlersEventMap[Name]) => unknown };
/** Attributes, properties and listeners of a node: app/dom.js. */
type Attributes = Listeners & { [name: string]: any };

/** What the page shows or says of one thing after another: how to stop it. */
type Stop = () => unknown;
type Point = [number, number];
type Region = { outline: Point[]; holes?: Point[][] | null; density?: number | null };

/** A refusal as a view sees it: app/api.js, app/main.js. */
type Refusal = import("/app/api.js").ApiError & Partial<Server.Refusal> & { field?: string | null; place?: { x?: number, y?: number, regions: number[], hole?: number } | null };

/** How a model, or what else is drawn, looks. */
type Look = { colour: string; dash?: number[] };

/** Inputs that are kept beside those on the screen: app/inputs.js. */
type Aside = { inputs: Server.Inputs; label: string; mine: boolean };

type CallOptions = {
  method?: string; json?: unknown; body?: BodyInit; query?: { [key: string]: any }; signal?: AbortSignal; keepalive?: boolean;
};
/** Of a call that says no method: what carries something is sent by POST. */
type MethodOf<Options> = Options extends { method: infer Method extends string } ? Method
  : Options extends { json: any } | { body: any } ? "POST" : "GET";
type Call = <const Path extends string, const Options extends CallOptions = {}>(path: Path, options?: Options)
  => Promise<Server.Answer<MethodOf<Options>, Path extends `/api/${infer Rest}` ? Rest : Path>>;

/** The argument of all views, from app/main.js. */
interface App {
  info: Server.Info;
  language: string;
  inputs: ReturnType<typeof import("/app/inputs.js").createInputs>;
  forms: ReturnType<typeof import("/app/forms.js").createForms>;
  body: ReturnType<typeof import("/app/facts.js").createBodyFacts>;
  project: ReturnType<typeof import("/project/saving.js").createProjects>;
  faults: typeof import("/app/faults.js").faults;
  superseded: typeof import("/app/api.js").superseded;
  copyTable: typeof import("/app/copy.js").copyTable;
  say: typeof import("/app/say.js").say;
  call: typeof import("/app/api.js").call;
  latest: typeof import("/app/api.js").latest;
  download: (path: string, json?: unknown, name?: string) => Promise<Refusal | void>;
  link: () => string;
  linkForAnother: () => Promise<unknown>;
  view: () => string;
  go: (view: string) => void;
}
interface Window { rockingFrames: any }

// What runs beside the page: questions/microphone-worklet.js.
declare class AudioWorkletProcessor { port: MessagePort }
declare function registerProcessor(name: string, kind: typeof AudioWorkletProcessor): void;

type Scale = { low: number; high: number; step: number | string; from: (value: number) => number; to: (place: number) => number };

// Tables: parts/table.js, app/copy.js.
type Column = { label: string; unit?: string; digits?: number; numeric?: boolean; nowrap?: boolean };

// The page has what its scripts look for, and a canvas draws in the plane.
interface Document { getElementById(id: string): HTMLElement }
interface HTMLCanvasElement { getContext(kind: "2d"): CanvasRenderingContext2D }

// Charts: charts/line.js. A gap in a column is null.
type Columns = (number | null)[][] | [number[], ...(number | null)[][]];
type ChartAxis = { label: string; unit?: string; log?: boolean; range?: unknown };
type ChartSeries = { label: string; colour: string; dash?: number[]; width?: number; points?: boolean };
type Band = { series: Point; fill: string };
type ChartOptions = {
  title: string; x: ChartAxis; y: ChartAxis; series: ChartSeries[]; height?: number; bands?: Band[]; sync?: string;
  onZoom?: (interval: Point | null) => unknown;
};
type Ticks = { colour: string; at: number[] };
type Marks = { vertical?: number[]; horizontal?: number[]; ticks?: Ticks[]; description?: string };
type Chart = ReturnType<typeof import("/charts/line.js").lineChart>;
type Time = { add: (chart: Chart) => Stop; show?: (instant: number) => unknown; onZoom?: ChartOptions["onZoom"] };

// Drawings to scale: drawing/viewport.js, drawing/axis.js.
type Ring = Point[];
type Box = { left: number; right: number; top: number; bottom: number };
type Viewport = { scale: number; x: (length: number) => number; y: (length: number) => number; back: (x: number, y: number) => Point };
type Axis = ReturnType<typeof import("/drawing/axis.js").axisOf>;
/** What a drawing of a body needs of its facts. */
type Drawn = Pick<Server.DescribedBody, "centre" | "foot_positions" | "outline" | "sides"> & { points?: number[][]; masses?: number[]; ground?: number };

// The scene: scene/stage.js. Lengths are in metres, the middle between the feet is at x = 0.
type Camera = { width: number; height: number; ratio: number; scale: number; middle: number; floor: number };
type Reach = { left: number; right: number; low: number; high: number };
type Colours = Record<"ink" | "soft" | "line" | "body" | "ground" | "hatch" | "impact" | "fall", string>;
type Track = import("/scene/track.js").Track;
type Shape = {
  regions: { outline: number[][]; holes: number[][][]; shade: number; path: Path2D }[]; points: number[][]; feet: number[]; centre: number[];
};
type Actor = {
  label: string; colour: string; dash: number[]; scaledDash: number[]; falls: boolean; rotation: Track; share: Track;
  impactTimes: Float64Array; impactFeet: Float64Array; impactWords: string[];
};
type Play = { shape: Shape; actors: Actor[]; ground: Track; end: number; restTime: number; description: string };

type VNode = import("/vendor/preact/preact.mjs").VNode;
type Signal<Of> = import("/vendor/preact/preact.mjs").Signal<Of>;
type Projects = ReturnType<typeof import("/project/saving.js").createProjects>;
type Questions = ReturnType<typeof import("/questions/asking.js").createQuestions>;

// A body in space, as its file holds it: space/glb.js. Lengths in metres, from the centre of mass, z up.
type SpaceStage = import("/space/stage.js").Stage;
/** Where one looks from: from x towards y, and above the ground [rad]; near: times the first distance. */
type Aim = { turned?: number; raised?: number; near?: number };
type SpacePose = { turn: number[]; height: number; support: number[][]; up_in_file: number[] };
type SpaceEdge = { name: string; from: number[]; to: number[] };
type SpaceMotion = { time: Float32Array; turn: Float32Array; centre: Float32Array; tilt: Float32Array };
type SpaceModel = {
  points: Float32Array; faces: Uint32Array; colours: Uint8Array | null; hull: Float32Array | null; motion: SpaceMotion | null;
  mended: Float32Array | null; base: number[][]; height: number; edges: SpaceEdge[]; poses: SpacePose[]; marks: { kind: string; position: number[] }[];
};

// Fields as components: parts/fields.js.
type FieldProps<Value> = {
  label: string; value?: Value | Signal<Value> | null; on?: (value: Value) => unknown; unit?: string; help?: string; error?: string; kind?: string;
  hidden?: boolean; [more: string]: any;
};
type Limits = { min?: number; above?: number; max?: number; integer?: boolean; moves?: boolean; optional?: boolean };
type NumberProps = FieldProps<number | null> & Limits & { step?: number; aside?: boolean };

/** Properties of a record that a user may state, the stated ones, and those that a file omits: views/motion-record-needs.js. */
type Need = Server.RecordFacts["needs"][number];
type Told = { format?: string; units?: string; time_step?: number; component?: string; vertical?: string };
type LeftOpen = { needs: Need[]; choices?: Server.RecordFacts["choices"]; components?: Server.ComponentFacts[]; [more: string]: any };

/** A file that was sent: its plain name, and its hash. */
type SentFile = { name: string; sha: string };
/** What was typed of single record files, by their names and keys. */
type FileTexts = { [name: string]: { [key: string]: string } };
/** What is typed in views, by view, and the form of one: app/forms.js. */
type Forms = { [view: string]: { [name: string]: any } };
type Form = { readonly value: any; at: (...path: string[]) => { value: any } };
/** What hinders asking: words, or words of a field. */
type Wrong = string | { key?: string; text: string };

// Views: requests and results (views/answer.js, questions/parts.js), drawings and selections.
type Asked<Found> = {
  answer: Signal<Found | null>; refused: Signal<Refusal | null>; closeup: Signal<any>; ask: () => void; shown: () => void; hidden: () => unknown;
  look: (window: Point | null) => Promise<undefined>;
};
type Player = import("/scene/player.js").Player;
type Margins = {
  questions: Questions; question: { readonly value: Server.WholeQuestion | null }; answer: { readonly value: any }; ask: () => unknown;
};
/** What a view of a question shows: `answer` is what its command prints with --json, which the schema leaves open. */
type Given = { answer: any; question: Server.WholeQuestion; questions: Questions };
/** What shakes a body as a job has it, the files that it needs, and what is missing. */
type Shaking = { tables?: any; files?: { [name: string]: string }; missing?: Wrong };
type Unit = Server.BodyInput["units"];
type Foot = "left" | "right";
/** How an entry of a table is changed: a value that is looked up where it may not be. */
type Words = { [key: string]: string | undefined };
/** The polygon editor: views/body-editor.js. */
type Editor = {
  state: {
    selected: Place; snap: boolean; step: number | null; grid: number | null; photo: any;
    tool: { kind: "pen" | "scale"; points: Ring; cursor: number[] | null } | null;
  };
  history: ReturnType<typeof import("/views/body-editor-model.js").createHistory>;
  drawn: Signal<number>; status: Signal<string>; board: ReturnType<typeof import("/views/body-editor-canvas.js").createCanvas>;
  tool: {
    put: (point: number[], reach?: number) => unknown; key: (name: string, times: number, start: () => number[]) => boolean; leave: () => void;
    take: (kind: "pen" | "scale") => unknown; close: (use?: (editor: Editor, points: Ring) => string | void) => unknown;
    say: (words: string) => unknown;
  };
  regions: () => Region[]; step: () => number; shown: () => boolean; section: () => any; units: () => Unit;
  facts: () => Server.DescribedBody | null; metres: () => number; refusal: () => any; refusalWords: () => string;
  change: (next: Region[], place?: Place) => void; adjust: (next: Region[], place?: Place) => void;
  weigh: (next: Region[], density: number | null) => void; replace: (section: object) => void; show: (section: object, place: Place) => void;
  keep: () => void; select: (place: Place) => void; snapped: (point: number[]) => number[]; travel: (direction: "undo" | "redo") => void;
  say: typeof import("/app/say.js").say; tell: () => void;
};
/** A vertex of the drawing: ring -1 is the outline, others are holes. */
type Place = { region: number; ring: number; vertex: number };
type Exact = (value: number) => number;
type Chosen = { models: string[]; value: number | null; feet: number[] | null };
type FigureKind = {
  title: string | ((lead: Server.ResponseFacts) => string); y: ChartAxis;
  series: (answers: Server.ResponseFacts[]) => ChartSeries[]; data: (answers: Server.ResponseFacts[], lead: Server.ResponseFacts) => Columns;
};
type RecordStep = { name: string; id: string; keys: { [key: string]: string } };
type StudyQuestion = { current: { name: string; tables: (inputs: Server.Inputs) => { kind: string; job: object } } };

// Maps: views/studies-grid.js, views/studies-layers.js.
type Cell = { ix: number; iy: number };
type PaintOf = (ix: number, iy: number) => string;
type Lines = Point[][];
type Layer = { value: string; text: string; legend: { paint: string; label: string }[]; paint: PaintOf };
type GridAxis = ReturnType<typeof import("/views/studies-grid.js").axisOf>;
/** The result of a map, unpacked: app/packed.js. */
type MapFound = Omit<Server.MapResult, "outcome" | "impacts" | "peak"> & { outcome: Row[][]; impacts: Row[][]; peak: Row[][] };
type Row = ArrayLike<number> & Iterable<number>;
/** An axis of a map, of which every value is a number. */
type MapAxis = Server.Coordinate & { values: number[] };
