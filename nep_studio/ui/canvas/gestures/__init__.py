"""What a person does with the mouse or a finger, one class for each gesture."""
