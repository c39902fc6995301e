"""What is known of words: frames, verbs and closed word classes, as data with sentences that test them."""
