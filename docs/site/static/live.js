"use strict";
// An example runs when someone opens it: until then nothing of it is loaded.
for (const example of document.querySelectorAll("details.live-example")) {
  example.addEventListener("toggle", () => {
    const frame = example.querySelector("iframe");
    if (example.open && !frame.getAttribute("src")) frame.src = frame.dataset.src;
  });
}
