import type { CoreError } from "./types";

export interface Explanation {
  what: string;
  mend: string;
  /** the core's own words */
  detail: string;
}

/** An error in words that a user understands, with what to do. */
export function explain(error: CoreError): Explanation {
  const [what, mend] = words(error);
  return { what, mend, detail: error.message };
}

function words({ code }: CoreError): [string, string] {
  switch (code) {
    case "unsupported_format":
      return [
        "This kind of file cannot be read.",
        "Export the scan as PLY, OBJ, STL, OFF, GLB, XYZ or PCD and drop that.",
      ];
    case "bad_file":
      return ["The file is damaged or incomplete.", "Export or copy the scan again, then drop the new file."];
    case "no_geometry":
      return [
        "The file holds too little geometry for a body.",
        "Check in another program that the file holds the scan, then export it again.",
      ];
    case "cannot_read":
      return ["The browser could not read the file.", "Check that it still exists, then drop it again."];
    case "out_of_memory":
      return [
        "The scan is too large for this browser's memory.",
        "Close other tabs, use a 64-bit browser, or reduce the scan to about 1 million vertices.",
      ];
    case "bad_model":
      return [
        "A model file cannot be used.",
        "If it is a file of your own, see below what is wrong with it. If not, reload the page: the site was not copied completely.",
      ];
    case "network":
      return [
        "A part of the program could not be loaded.",
        "Check the connection to this site, then try again. Your scan stays here.",
      ];
    case "usage":
      return ["These settings do not go together.", "Change the setting named below and run again."];
    case "not_available":
      return ["This build cannot do that yet.", "Choose another setting."];
    case "cancelled":
      return ["Stopped.", "Run again whenever you like."];
    default:
      return [
        "Something went wrong inside the program.",
        "Try again; if it happens again, please report it with the text below.",
      ];
  }
}
