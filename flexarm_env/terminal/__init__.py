"""Tools that command line, lab, demo and thesis share: files in, progress, tables, files out."""
