"""The report as values (blocks), and as HTML, Markdown, CSV, SVG, PNG and PDF."""
