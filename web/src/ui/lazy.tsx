import { useSignal } from "@preact/signals";
import type { ComponentType } from "preact";
import { useEffect } from "preact/hooks";

/** A part of the page that is loaded when it is first shown. */
export function lazyPart(load: () => Promise<ComponentType>): ComponentType {
  let loaded: ComponentType | null = null;
  return function Part() {
    const part = useSignal<ComponentType | null>(loaded);
    const failed = useSignal(false);
    useEffect(() => {
      if (loaded) return;
      load().then(
        (component) => {
          loaded = component;
          part.value = component;
        },
        () => {
          failed.value = true;
        },
      );
    }, [part, failed]);
    if (failed.value) {
      return (
        <p class="problem" role="alert">
          This part of the program could not be loaded. Check the connection to this site and reload the page.
        </p>
      );
    }
    const Component = part.value;
    return Component ? <Component /> : null;
  };
}
