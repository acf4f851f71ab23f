"""The sandbox: containers ("cells") for student code, and the limits of these containers."""
