x = '\ud800'
say('\ud800')
