// Draws the formulas of a page.
for (const place of document.querySelectorAll(".arithmatex")) {
    const text = place.textContent.trim(), shown = text.startsWith("\\[");
    katex.render(text.slice(2, -2), place, {displayMode: shown, throwOnError: false, strict: "ignore"});
}
