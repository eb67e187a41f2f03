"""What is asked: a scene, its TOML file, and the cautions it deserves."""
