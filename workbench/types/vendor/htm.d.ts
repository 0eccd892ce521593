// A function in a template is a listener or a property of a component; the template does not say what it is given.
type Place = string | number | boolean | null | undefined | object | ((...given: any[]) => any);
type Template = (strings: TemplateStringsArray, ...places: Place[]) => import("./preact").VNode;
declare const htm: { bind(h: unknown): Template };
export default htm;
