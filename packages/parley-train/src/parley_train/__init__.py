"""What the tagger is trained with: annotated sentences, and the program that trains it (`make train`)."""
