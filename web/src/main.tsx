import { render } from "preact";
import { installServiceWorker } from "./core/isolation";
import "./styles.css";
import { App } from "./ui/App";

if (await installServiceWorker()) render(<App />, document.getElementById("app")!);
