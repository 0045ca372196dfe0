"""The pages of single studies: control, optimal design, paths, and the reproduced paper."""
