"""What a person does with several blocks at once: each is one step of undo, or refused."""
