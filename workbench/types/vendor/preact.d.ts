// What the page uses of Preact, its hooks and its signals.
export interface VNode { type: any; props: any }
export const h: (type: any, props: any, ...children: any[]) => VNode;
export const createContext: <Value>(value: Value) => { Provider: any; value: Value };
export const render: (node: VNode | null, place: Element | DocumentFragment) => void;

type Effect = () => void | (() => void);
export const useEffect: (effect: Effect, inputs?: readonly unknown[]) => void;
export const useLayoutEffect: (effect: Effect, inputs?: readonly unknown[]) => void;
export const useState: (first?: any) => [any, (next: any) => void];
export const useContext: (context: { value: unknown }) => any;
export const useMemo: <T>(make: () => T, inputs: readonly unknown[]) => T;
/** What a place will hold that begins with nothing, an empty list or an empty table is said beside it, or not at all. */
type Held<First> = [keyof First] extends [never] ? any : First extends never[] ? any[] : First;
export const useRef: <First>(first: First) => { current: Held<First> };

export interface Signal<T> { value: T; peek(): T; subscribe(watcher: (value: T) => void): () => void }
export const signal: <First>(first: First) => Signal<Held<First>>;
export const computed: <T>(make: () => T) => Readonly<Signal<T>>;
export const batch: <T>(change: () => T) => T;
